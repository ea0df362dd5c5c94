"""Hard cases, a file per topic: each function checks the scene of its name and says in its first line what holds."""

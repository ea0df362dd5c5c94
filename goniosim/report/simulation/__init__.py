"""What is said and drawn about one simulation, before and after it ran."""

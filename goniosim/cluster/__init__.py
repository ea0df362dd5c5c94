"""From one machine to many: compiled code kept ready, work in shards, and the batch system that runs them."""

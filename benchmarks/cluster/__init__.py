"""What shards cost beside their work, measured, and what follows for ten thousand of them."""

"""What is said and drawn about a file of integrated models."""

"""What is exactly known of scenes, by other ways than those of the simulation: nothing here uses its physics."""

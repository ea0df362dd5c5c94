"""What the figures of simulations and of comparisons share: panels, tone, views of a slice, legends."""

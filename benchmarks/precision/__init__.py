"""How exact the scalar functions and the cells are: each against the same mathematics in 40 digits."""

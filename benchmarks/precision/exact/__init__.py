"""The oracles: formulas as they stand in the books, in mpmath. Nothing here uses goniosim.

Arguments are mpf made of the very floats that goniosim is given. Digits are those in force when a function is called;
near-equal numbers are subtracted without care, since there is room for it.
"""

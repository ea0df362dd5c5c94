"""The oracles: formulas as they stand in the books, in mpmath. Nothing here uses goniosim.

Arguments are mpf made of the floats that goniosim is given, so that their rounding counts against nobody. Digits are
those in force when a function is called; near-equal numbers are subtracted without care, since 40 digits have room for it.
"""

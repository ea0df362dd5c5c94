"""The report of a comparison: tables, figures, and the folder that holds them."""

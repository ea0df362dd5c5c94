"""What a person sees: tables of text, progress on a terminal, pictures.

Nothing is imported here, so that a table never waits for matplotlib.
"""

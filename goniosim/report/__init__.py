"""What a person sees: tables of text, progress on a terminal, pictures; a room for each thing that is read.

Nothing is imported here, so that a table never waits for matplotlib.
"""

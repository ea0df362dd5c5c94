"""The command line: parses, calls, prints. Physics, files and figures are in the package goniosim."""

"""Belcour 2018 and its variants: energies and widths of GGX lobes from one sweep through the stack."""

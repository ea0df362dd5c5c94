"""What accuracy costs in time: docs/accuracy_and_time.md with its tables and pictures, measured anew.

``python -m benchmarks.accuracy_and_time`` measures the price lists of a plastic, a metal, a slab and a narrow slab
(``benchmarks/stacks``), and writes the page from them: one file for each part of it.
"""

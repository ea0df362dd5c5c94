"""The study of Bati, Pacanowski and Barla 2019, redone: its written findings held against our numbers.

``python -m benchmarks.paper_study out/paper`` reads a folder of the 60 results and their comparison, and
writes docs/paper_study.md, its pictures, docs/errors.png and the tables of README.md; ``--experiments`` first
runs what varies the choices (minutes). `make paper` does all of it.
"""

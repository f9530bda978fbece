"""Evidence for the library's promises: parts that run, the table of their figures, and the record of long runs.

record.py   rows of the table, and the file that keeps them
parts.py    the list of parts; each is a module here with ``run(amount) -> Result``
command.py  ``python -m ci evidence``
"""

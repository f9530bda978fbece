"""What shows that the library is as it says: parts that run, the table of their figures, and the record of long runs.

record.py   rows of the table, the file that keeps them
parts.py    which parts there are; each is a module here with ``run(amount) -> Result``
command.py  ``python -m ci evidence``
"""

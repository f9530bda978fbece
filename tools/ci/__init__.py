"""Checks of the repository itself, for those who change it. ``python -m ci --help``."""

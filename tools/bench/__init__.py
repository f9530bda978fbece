"""Comparisons of the estimator with references and goals. ``python -m bench --help``."""

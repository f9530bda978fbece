"""What the estimator is held against, for those who change it. ``python -m bench --help``."""

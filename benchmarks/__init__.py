"""Measurements and the tables they print; each is a command of its own."""

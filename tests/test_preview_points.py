"""A preview's points come back as they were written."""

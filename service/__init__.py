"""The ways in (HTTP, command line, jobs) and the use cases that join worker and index."""

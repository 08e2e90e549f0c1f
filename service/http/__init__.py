"""The way in by HTTP: routes, what they are given, and how answers and errors leave."""

"""The kinds of creature: each file makes one body and names its poses."""

"""How two shapes are related, by what is stored of them, and which of a library's shapes are duplicates."""

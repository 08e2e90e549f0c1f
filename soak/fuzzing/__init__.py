"""Damaged files by the ten thousand: how they are made, what is expected of their readers, who watches."""

"""Jobs: claimed, computed in processes of their own, recorded."""

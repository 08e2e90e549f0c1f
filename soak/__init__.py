"""What breaks the service on purpose, for as long as it takes, and checks its promises: `make soak`."""

"""An upload on its way from the network or the disk to durable files."""

"""What operators see: numbers, logs, traces, and whether the parts are ready."""

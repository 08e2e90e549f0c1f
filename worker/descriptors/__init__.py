"""From spectra and colours to the numbers that are compared."""

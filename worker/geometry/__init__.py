"""Surfaces: repair, resampling, operators and their spectra."""

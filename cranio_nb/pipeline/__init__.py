"""Scan -> design: one run, one trial of a method, several methods compared."""

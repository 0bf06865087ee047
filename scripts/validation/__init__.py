"""Validation studies of the fluid: real runs, their stored results, and the report made from them."""

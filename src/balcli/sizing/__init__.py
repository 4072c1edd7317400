"""Sizing of counterweights, balancer shafts and sliders: every scheme is a choice of devices for one least squares."""
from .auto import auto
from .remedy import Remedy, fitted

__all__ = ["Remedy", "auto", "fitted"]

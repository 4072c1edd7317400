"""An engine file in, an `Engine` out: SI arrays, one row a cylinder."""

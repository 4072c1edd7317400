"""Balance an `Engine` by a scheme: the fitted devices, and the engine before and after."""

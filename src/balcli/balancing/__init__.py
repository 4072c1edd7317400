"""An `Engine` and a scheme in; the fitted devices and the engine before and after out."""

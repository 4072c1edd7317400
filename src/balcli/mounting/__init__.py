"""An engine on its mounts: modes, statics, and loads on the frame."""

"""An engine on its mounts: modes, statics, and what reaches the frame."""

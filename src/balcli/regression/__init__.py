"""Compare engines with recorded results (`balcli check`)."""

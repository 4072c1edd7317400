"""Pictures of an analysis: matplotlib, imported only here and only when one is asked for."""

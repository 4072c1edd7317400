"""What all tests share: hypothesis repeats itself and has no deadline (machines are shared)."""
from hypothesis import settings

settings.register_profile("repeatable", deadline=None, derandomize=True, max_examples=60)
settings.load_profile("repeatable")

"""Shared by several tests."""

import signal

import pytest


@pytest.fixture
def interruptible():
    """Makes Ctrl-C raise KeyboardInterrupt, even if the shell that started the tests made them ignore it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)

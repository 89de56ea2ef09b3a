"""The signals that stop a program."""

import signal

WARNINGS = (signal.SIGUSR1, signal.SIGUSR2, signal.SIGXCPU)  # warnings of batch systems


def stop_signals() -> list[signal.Signals]:
    """The signals that stop clogsweep. Under nohup SIGHUP is not one of them, because nohup makes programs ignore
    it."""
    ends = [signal.SIGINT, signal.SIGTERM]
    return [*WARNINGS, *ends] if signal.getsignal(signal.SIGHUP) == signal.SIG_IGN else [*WARNINGS, *ends, signal.SIGHUP]

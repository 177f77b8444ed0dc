# SPDX-License-Identifier: GPL-3.0-or-later
"""What is ended when the extension is disabled, and what the status bar shows meanwhile."""

from types import SimpleNamespace
from unittest.mock import MagicMock

import pytest
from limit_surface.tasks import running, status_bar
from limit_surface.tasks.running import Running
from limit_surface.tasks.status_bar import StatusText
from limit_surface.tasks.watched_operator import WatchedOperator
from stand_ins import event, status_text, window_context


@pytest.fixture(autouse=True)
def nothing_runs(monkeypatch):
    monkeypatch.setattr(running, "_all", [])
    monkeypatch.setattr(status_bar, "_shown", [])


def test_all_is_ended_also_where_one_fails():
    ended = []

    def fail(_context):
        raise ReferenceError

    context = window_context()
    for end in (lambda _: ended.append(1), fail, lambda _: ended.append(2)):
        Running(context, end)
    running.end_all()
    assert ended == [2, 1]
    running.end_all()
    assert ended == [2, 1]


def test_what_is_over_is_not_ended():
    end = MagicMock()
    one = Running(window_context(), end)
    one.over()
    one.over()
    running.end_all()
    end.assert_not_called()


class Worker(WatchedOperator):
    properties = SimpleNamespace()

    def __init__(self):
        self.report = MagicMock()


def waiting_job():
    job = MagicMock()
    job.wait.return_value, job.advance.return_value, job.part = False, False, 0.5
    return job


def test_a_job_is_cancelled_and_its_text_and_timer_go():
    operator, context, job = Worker(), window_context(), waiting_job()
    operator._someone_waits = True
    assert operator.watch(context, job, "Making 1,000 points") == {"RUNNING_MODAL"}
    operator.modal(context, event("TIMER"))
    assert status_text(context) == "Making 1,000 points: 50%    ESC: Cancel"
    running.end_all()
    job.cancel.assert_called_once()
    context.window_manager.event_timer_remove.assert_called_once()
    context.workspace.status_text_set.assert_called_with(None)


def test_a_job_that_was_cancelled_is_not_ended_again():
    operator, context, job = Worker(), window_context(), waiting_job()
    operator._someone_waits = True
    operator.watch(context, job, "Making 1,000 points")
    assert operator.modal(context, event("ESC")) == {"CANCELLED"}
    running.end_all()
    job.cancel.assert_called_once()


def test_the_status_bar_of_another_window_stays_as_it_is():
    """The text is drawn by window, whatever workspace the window shows."""
    one, other = window_context(), window_context()
    text = StatusText(one)
    text.show("Making")
    assert status_text(one) == "Making"
    draw = one.workspace.status_text_set.call_args.args[0]
    one.workspace = MagicMock()  # somebody changes to another workspace
    header = MagicMock()
    type(header)._draw_orig = MagicMock()
    draw(header, other)
    type(header)._draw_orig.assert_called_once_with(header, other)
    header.layout.label.assert_not_called()
    text.clear()
    one.workspace.status_text_set.assert_called_with(None)


def test_a_text_in_another_window_is_kept_where_one_ends():
    one, other = window_context(), window_context()
    first, second = StatusText(one), StatusText(other)
    first.show("Making")
    second.show("Dragging")
    first.clear()
    assert one.workspace.status_text_set.call_args.args[0] is not None
    assert status_text(other) == "Dragging"
    second.clear()
    other.workspace.status_text_set.assert_called_with(None)

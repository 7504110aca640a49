"""`rocking record`: the tables are as wide as the terminal."""

from __future__ import annotations

from typing import Any

from rocking_cli.cli import terminal
from rocking_cli.cli.made import Made
from rocking_cli.plugins.rooms import short_help
from rocking_cli.questions.record.asked import RecordAsked


class RecordCommand(Made):
    """Command that shows a record as a column on a terminal, and as a row in a pipe."""

    def show(self, answer: Any, *, as_json: bool) -> None:
        """Show an answer."""
        from rocking_cli.ask.answer import Answers
        from rocking_cli.questions.record.view import parts
        from rocking_cli.views.view import View

        answers = answer.values() if isinstance(answer, Answers) else [answer]
        examined = [seen for each in answers for seen in each.examined]
        terminal.show(View({}, list(parts(examined, terminal.width()))), as_json=as_json)


command = RecordCommand("record", RecordAsked, short_help("record"))

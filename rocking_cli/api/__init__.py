"""What Python users ask: a verb a question, an answer that shows itself. `rocking_cli` hands it on."""

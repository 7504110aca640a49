"""Python interface: one function per question, which returns an answer that displays itself."""

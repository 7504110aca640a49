"""The built-in mechanisms. They come in through the entry points `rocking.mechanisms`, like anybody's."""

"""What other packages add: mechanisms, record readers, pulse shapes and measures of intensity."""

"""What other packages add: mechanisms, record readers and pulse shapes."""

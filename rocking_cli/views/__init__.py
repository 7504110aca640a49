"""What results say: rows, plain data and sentences, one result a file, for whoever shows them."""

"""The reference: a page for each entry of a description, each command, each document and each name in Python."""

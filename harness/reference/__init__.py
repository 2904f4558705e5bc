"""The reference: pages of entries, commands, documents and Python names."""

"""What a log holds before any profile: blocks of columns, and how tables, arrays and messages become such."""

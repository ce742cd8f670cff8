"""``python -m rovval`` is ``rovval``."""

from rovval.cli import main

if __name__ == "__main__":
    main()

"""What every report uses: the formatter of numbers, the page, drawings and curves, files that appear together."""

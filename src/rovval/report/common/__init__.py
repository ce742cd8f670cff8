"""What every report uses: the formatter of numbers, the page, the glossary, files that appear together."""

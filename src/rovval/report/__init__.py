"""Reports of a Comparison or a Diagnosis: json for machines, md and html for people, a rerun recording to look around in."""

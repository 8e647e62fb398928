"""The studies behind the numbers and pictures of doc/: `scripts/study --list` names them."""

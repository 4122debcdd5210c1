"""The claims of the hand-written texts, and the check that compares them with the data."""

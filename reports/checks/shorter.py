"""Texts without measured figures: each number in them is a definition."""

from checks.claims import Claims

CRITERION = """
    measure two things
    two times of one run
"""
HEAP = """
    measures one structure twice
    between two copies of one structure
    in two programs
"""
CLUSTER = """
    Slurm array of eight jobs
    between two machines
"""
ALGORITHMS = """
    Each of the seven subdivision schemes
    three methods
    √3
    A bar with two holes
    sharp for two levels
    if two vertices move
    Three algorithms use
"""

TEXTS = [
    Claims("reports/criterion/README.md", CRITERION),
    Claims("reports/heap/README.md", HEAP),
    Claims("reports/cluster/README.md", CLUSTER),
    Claims("docs/algorithms.md", ALGORITHMS),
]

"""Whether the commits that the texts name are in the history."""

import subprocess

from checks import data


def git(*arguments):
    """Returns whether git succeeds, and what it prints; None if there is no git."""
    try:
        ran = subprocess.run(["git", "-C", str(data.ROOT), *arguments], capture_output=True, text=True, check=False)
    except OSError:
        return None
    return ran.returncode == 0, ran.stdout.strip()


def obstacle():
    """Returns why commits cannot be checked, or None."""
    if git("--version") is None:
        return "git is not installed"
    inside, top = git("rev-parse", "--show-toplevel")
    if not inside or not data.ROOT.samefile(top):
        return "there is no history (a source archive)"
    if git("rev-parse", "--is-shallow-repository") == (True, "true"):
        return "the clone is shallow"
    return None


def known(commit):
    """Returns whether the commit is an ancestor of HEAD, so that every clone has it."""
    return git("cat-file", "-e", f"{commit}^{{commit}}")[0] and git("merge-base", "--is-ancestor", commit, "HEAD")[0]

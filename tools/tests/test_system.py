"""What the machine must have: what is missing is installed, or named with where it is to be had."""

import os

import pytest

import shell
import system


@pytest.fixture
def user(monkeypatch):
    """A user who may not install anything."""
    monkeypatch.setattr(os, "geteuid", lambda: 1000)


def need(found, without=""):
    return system.Need("a thing", "libthing-dev", "https://example.org", lambda: found, without)


def test_installed_packages_are_not_mentioned(user, capsys):
    system.require([need(True), need(True, "nothing")])
    assert capsys.readouterr().out == ""


def test_missing_programs_are_named_with_their_package(user):
    with pytest.raises(shell.StepError, match="apt-get install --no-install-recommends libthing-dev"):
        system.require([need(False)])


def test_missing_optional_programs_are_reported(user, capsys):
    system.require([need(False, "it takes longer")])
    assert "there is no a thing (Debian: libthing-dev, elsewhere: https://example.org): it takes longer" in (
        capsys.readouterr().out
    )


def test_the_list_of_required_packages_leaves_out_optional_ones(user):
    other = system.Need("ccache", "ccache", "https://ccache.dev", lambda: False, "it takes longer")
    with pytest.raises(shell.StepError) as error:
        system.require([need(False), other])
    assert "libthing-dev" in str(error.value) and "ccache" not in str(error.value)


def test_apt_runs_as_root_and_its_success_is_verified(monkeypatch):
    asked, there = [], []
    monkeypatch.setattr(os, "geteuid", lambda: 0)
    monkeypatch.setattr(system.shutil, "which", lambda name: f"/usr/bin/{name}")
    monkeypatch.setattr(system, "apt_install", lambda packages: (asked.append(packages), there.append(1)))
    system.require([system.Need("a thing", "libthing-dev", "", lambda: bool(there))])
    assert asked == [["libthing-dev"]]
    monkeypatch.setattr(system, "apt_install", asked.append)
    with pytest.raises(shell.StepError, match="this machine lacks"):
        system.require([need(False)])

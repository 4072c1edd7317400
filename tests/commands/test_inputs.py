"""Several engines side by side are told apart."""

from balcli.commands.inputs import name_engines


def test_engines_of_one_name_and_nameless_ones_go_by_their_files():
    assert name_engines(["i4", "V8", "i4", ""], ["a.toml", "b.toml", "c.toml", "d.toml"]) == [
        "a.toml",
        "V8",
        "c.toml",
        "d.toml",
    ]

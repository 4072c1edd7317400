"""Scripts and style sheets in a page: shorter, and the same."""

import pytest

from balcli.report.slim_text import slim_script, slim_style


@pytest.mark.parametrize(
    ("script", "slim"),
    [
        ("const a = b + 1;   // a // b\n", "const a=b+1;"),
        ("a = b - -c;\nd = + +e;", "a=b- -c;d=+ +e;"),
        ("f(a)\ng(b)", "f(a)\ng(b)"),
        ("const f = () => {\n  return a;\n}\n(b)", "const f=()=>{return a;}\n(b)"),
        ("x\n  .f((a) => a)\n  .g();", "x.f((a)=>a).g();"),
        ('f("a  // b", \'c ; d\');  // "e', "f(\"a  // b\",'c ; d');"),
        ("const t = `a // ${b + `c ; d` } \\` e`;", "const t=`a // ${b + `c ; d` } \\` e`;"),
        ("t = `${f({ a: 1 })} = x`;", "t=`${f({ a: 1 })} = x`;"),
        ('a.match(/^[/ ] \\/+ "/g) || b / c / d', 'a.match(/^[/ ] \\/+ "/g)||b/c/d'),
        ("if (a in b) throw new Error(c)", "if(a in b)throw new Error(c)"),
    ],
)
def test_a_script_keeps_its_meaning(script, slim):
    assert slim_script(script) == slim


def test_a_style_sheet_keeps_spaces_that_mean_something():
    style = 'main > p:not(.a) b,\ni { margin: 0 calc(1px + 2px); content: " · ";\n }\n'
    assert slim_style(style) == 'main > p:not(.a) b,i{margin:0 calc(1px + 2px);content:" · "}'

"""The page: one HTML file with everything in it."""

import base64
import html
import pathlib
import shlex
import sys
import time

from cases import ImageCase, TestCase
from run import mean_text

WORDS = {"pass": "passed", "fail": "failed", "skipped": "skipped", "error": "error"}
HEAD = ("case", "MSE", "MAE", "max", "image mean, ours / reference − 1", "verdict")


def text(value):
    return html.escape(str(value))


def inline(file):
    return "data:image/png;base64," + base64.b64encode(pathlib.Path(file).read_bytes()).decode()


def number(value):
    """Three digits, with an exponent where that is shorter."""
    return f"{value:.3g}" if 0.01 <= value < 1000 or value == 0 else f"{value:.2e}"


def verdict(result):
    return f'<span class="verdict {result.status}">{WORDS[result.status]}</span>'


def meta(results, seconds, options):
    report = next((r.report for r in results if r.report), {})
    count = {status: sum(r.status == status for r in results) for status in WORDS}
    totals = ", ".join(f'<span class="verdict {s}">{n} {WORDS[s]}</span>' for s, n in count.items() if n)
    device = f"{report['device']}, {report['driver']}" if report.get("driver") else report.get("device", "–")
    entries = [("cases", totals), ("version", text(report.get("version", "–"))),
               ("back end", text(report.get("backend", options.backend))), ("device", text(device)),
               ("date", time.strftime("%Y-%m-%d %H:%M")), ("took", f"{seconds / 60:.1f} min")]
    if options.spp_scale != 1:
        entries.append(("samples", f"× {options.spp_scale:g} of the default"))
    return '<dl class="meta">' + "".join(f"<div><dt>{k}</dt><dd>{v}</dd></div>" for k, v in entries) + "</dl>"


def error_cell(result, name):
    if not result.figures:
        return '<td class="number">–</td>'
    baseline = result.case.baseline
    below = f"<small>baseline {number(getattr(baseline, name))}</small>" if baseline else ""
    return f'<td class="number">{number(result.figures[name])}{below}</td>'


def summary_row(result):
    case = result.case
    cells = [f'<td><a href="#{case.name}">{text(case.title)}</a></td>']
    if isinstance(case, ImageCase):
        cells += [error_cell(result, name) for name in ("mse", "mae", "max")]
        cells.append(f'<td class="number">{mean_text(result.figures) if result.figures else "–"}</td>')
    else:
        said = f"<small>baseline: {text(case.baseline)}</small>" if isinstance(case, TestCase) else ""
        first = result.lines[0] if result.lines else "; ".join(f"{c.text}: {c.value}" for c in result.checks)
        cells.append(f'<td colspan="4">{text(first or "–")}{said}</td>')
    return "<tr>" + "".join(cells) + f"<td>{verdict(result)}</td></tr>"


def summary(results):
    head = "".join(f'<th{"" if name in ("case", "verdict") else " class=number"}>{name}</th>' for name in HEAD)
    rows = "\n".join(summary_row(result) for result in results)
    return f'<div class="scroll"><table>\n<tr>{head}</tr>\n{rows}\n</table></div>'


def checks_table(result):
    rows = "".join(f'<tr><td>{text(c.text)}</td><td>{text(c.value)}</td>'
                   f'<td class="verdict {"pass" if c.passed else "fail"}">{"yes" if c.passed else "NO"}</td></tr>'
                   for c in result.checks)
    head = "<tr><th>criterion</th><th>measured</th><th>met</th></tr>"
    return f'<div class="scroll"><table class="checks">{head}{rows}</table></div>'


def pictures(result):
    figures = "".join(f'<figure><img alt="{text(caption)}" src="{inline(file)}">'
                      f"<figcaption>{text(caption)}</figcaption></figure>\n" for file, caption in result.pictures)
    return f'<div class="figures">\n{figures}</div>'


def facts(result):
    """What was rendered, in a line."""
    case, report = result.case, result.report
    if not isinstance(case, ImageCase) or not report:
        return ""
    line = f"{report['filmSize'][0]} × {report['filmSize'][1]} pixels, {report['samples']} samples each, " \
           f"{report['seconds']:.1f} s of rendering."
    budget = result.figures["budget"]
    if budget and case.noisy:
        line += f" Systematic difference, root mean square over pixels: at most {number(budget['largestBias'])} (95 %)."
    return f'<p class="soft">{line}</p>'


def section(result):
    case = result.case
    parts = [f'<h2 id="{case.name}">{text(case.title)} {verdict(result)}</h2>', f"<p>{text(case.text)}</p>"]
    if result.reason:
        parts.append(f"<pre>{text(result.reason)}</pre>")
    parts.append(facts(result))
    if result.lines:
        parts.append("<pre>" + text("\n".join(result.lines)) + "</pre>")
    if isinstance(case, TestCase):
        parts.append(f'<p class="soft">Baseline: {text(case.baseline)}.</p>')
    if result.checks:
        parts.append(checks_table(result))
    if result.pictures:
        parts.append(pictures(result))
    if result.commands:
        parts.append(f"<details><summary>Commands</summary><pre>{text(chr(10).join(result.commands))}</pre></details>")
    return "\n".join(part for part in parts if part)


INTRODUCTION = """<p>Each picture is rendered here and measured, in linear RGB, against a reference: a picture by
Mitsuba 3.9.1 with the variance of its mean, from independent seeds, or one computed from a formula. <em>Baseline</em>
figures are those of the renderer that Parhelion starts from, an extension of Nori, for the scene of that kind in its
own report.</p>
<p>Between two unbiased pictures the mean squared error is the sum of their variances. Where a case demands that, as
where it demands agreement by z, the test has a significance of 10<sup>−6</sup>, a family of regions sharing it by
Šidák; the noise of both sides counts. Intervals are 95 % ones, that of the mean from the lowest to the highest end of
the three channels'.</p>"""


def render(results, seconds, options):
    """The whole page. Reads the pictures that the results name."""
    css = (pathlib.Path(__file__).parent / "page.css").read_text()
    command = shlex.join(["tools/validate", *sys.argv[1:]])
    body = [f"<h1>Parhelion: validation</h1>\n{meta(results, seconds, options)}\n{INTRODUCTION}",
            f"<pre>{text(command)}</pre>", summary(results)] + [section(result) for result in results]
    return ("<!doctype html>\n<html lang=en>\n<head><meta charset=utf-8>"
            '<meta name=viewport content="width=device-width, initial-scale=1">'
            f"<title>Parhelion: validation</title>\n<style>\n{css}</style></head>\n<body>\n" + "\n".join(body) +
            "\n</body>\n</html>\n")

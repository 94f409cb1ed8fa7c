#include <fmt/format.h>

#include "analysis/svg_plot.h"
#include "app/render_report.h"
#include "app/text_format.h"

namespace parhelion::app {

namespace {

constexpr const char* kStyle = R"(
:root{color-scheme:light dark;--ink:#1d2126;--soft:#5b6470;--rule:#d5dae0;--page:#fff;--good:#0a6b45;--bad:#a8330b}
@media(prefers-color-scheme:dark){:root{--ink:#e6e9ed;--soft:#a3adb8;--rule:#39424c;--page:#15191e;--good:#5fd0a0;--bad:#ff9a6b}}
@media print{:root{--ink:#000;--soft:#444;--rule:#bbb;--page:#fff;--good:#000;--bad:#000}}
body{margin:0 auto;max-width:46rem;padding:1.2rem 1rem 3rem;font:16px/1.5 system-ui,sans-serif;color:var(--ink);background:var(--page)}
h1{font-size:1.5rem;margin:.2rem 0}h2{font-size:1.1rem;margin:2rem 0 .4rem}p{margin:.5rem 0}.soft{color:var(--soft)}
.wide{overflow-x:auto}table{border-collapse:collapse;width:100%;font-variant-numeric:tabular-nums}
th,td{padding:.3rem .6rem .3rem 0;text-align:left;border-bottom:1px solid var(--rule);vertical-align:top}
th{font-weight:600}td.n{white-space:nowrap}.passed{color:var(--good)}.failed{color:var(--bad);font-weight:600}.notJudged{color:var(--soft)}
svg.plot{width:100%;height:auto;display:block}svg.plot text{fill:currentColor;font-size:12px}
@media(max-width:34rem){svg.plot text{font-size:18px}}
svg.plot .grid{stroke:var(--rule);stroke-width:1;fill:none}svg.plot .line{stroke:var(--soft);stroke-width:1.2;stroke-dasharray:2 3;fill:none}
section{break-inside:avoid})";

std::string row(const std::string& name, const std::string& value, const std::string& interval) {
    return fmt::format("<tr><td>{}</td><td class=n>{}</td><td class=n>{}</td></tr>\n", name, value, interval);
}

std::string percentRow(const std::string& name, const Interval& interval) {
    return row(name, formatPercent(interval.value),
               fmt::format("{} to {}", formatPercent(interval.lower), formatPercent(interval.upper)));
}

std::string estimates(const FilmError& error) {
    std::string text = "<div class=wide><table><tr><th>How wrong</th><th>estimate</th><th>95 % interval</th></tr>\n";
    text += percentRow("Root mean square error over pixels, of the image's mean", error.rms);
    text += row("Relative mean squared error (relMSE)", fmt::format("{:.3g}", error.relativeMse.value),
                fmt::format("{:.3g} to {:.3g}", error.relativeMse.lower, error.relativeMse.upper));
    constexpr const char* kNames[] = {"red", "green", "blue", "luminance"};
    for (std::size_t c = 0; c < 4; ++c)
        text += row(fmt::format("Mean of the image, {}", kNames[c]), fmt::format("{:.5g}", error.mean[c].value),
                    fmt::format("{:.5g} to {:.5g}", error.mean[c].lower, error.mean[c].upper));
    text += "</table></div>\n<div class=wide><table><tr><th>Pixels by their own 95 % intervals</th><th></th></tr>\n";
    const auto line = [&text](const char* name, const std::string& value) {
        text += fmt::format("<tr><td>{}</td><td class=n>{}</td></tr>\n", name, value);
    };
    line("half of them are within", formatPercent(error.pixels[0]));
    line("95 % of them are within", formatPercent(error.pixels[1]));
    line("99 % of them are within", formatPercent(error.pixels[2]));
    line("share of all pixels known to 1 %", formatPercent(error.pixelsWithin));
    line("share whose interval can be trusted", formatPercent(error.pixelsTrusted));
    line("share that got nothing but zeros: unknown", formatPercent(error.pixelsDark));
    line("share that is lit, but unevenly: no interval can be trusted", formatPercent(error.pixelsSpiky));
    return text + "</table></div>\n<p class=soft>The first three lines are about the pixels that can be trusted.</p>\n";
}

std::string checksTable(const std::vector<TrustCheck>& checks) {
    std::string text = "<div class=wide><table><tr><th>Check</th><th>found</th><th>wanted</th><th></th></tr>\n";
    for (const TrustCheck& check : checks) {
        const bool passed = check.verdict == TrustCheck::Verdict::Passed;
        const bool failed = check.verdict == TrustCheck::Verdict::Failed;
        text += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td class={}>{}</td></tr>\n",
                            escapeMarkup(check.name), escapeMarkup(check.found), escapeMarkup(check.wanted),
                            passed   ? "passed"
                            : failed ? "failed"
                                     : "notJudged",
                            passed   ? "passed"
                            : failed ? "failed"
                                     : "not judged");
    }
    return text + "</table></div>\n";
}

std::string curve(const ErrorReport& report) {
    LogPlot plot;
    plot.title = "Error against time";
    plot.xName = "time spent rendering";
    plot.yName = fmt::format("error ({})", nameOf(report.norm));
    plot.yIsShare = plot.xIsTime = true;
    PlotSeries series;
    for (const ErrorCheckpoint& point : report.checkpoints) series.points.push_back({point.seconds, point.error, 0, 0});
    plot.series.push_back(series);
    if (report.target) plot.lines.push_back({"target", *report.target});
    return series.points.size() < 2 ? "" : toSvg(plot);
}

}  // namespace

std::string errorPage(const RenderReport& report) {
    const ErrorReport& error = report.error;
    std::string page = fmt::format(
        "<!doctype html>\n<html lang=en><head><meta charset=utf-8><meta name=viewport "
        "content='width=device-width,initial-scale=1'>\n<title>How wrong is "
        "{}</title>\n<style>{}</style></head><body>\n",
        escapeMarkup(report.exr), kStyle);
    page += fmt::format("<h1>How wrong is {}?</h1>\n<p class=soft>{}, {}, {:.6g} samples per pixel, {} on {}</p>\n",
                        escapeMarkup(report.exr), escapeMarkup(report.scene), formatSize(report.cropSize),
                        report.samplesPerPixel, formatDuration(report.seconds), escapeMarkup(report.device));
    if (!error.estimate || !error.estimate->isFinite)
        return page +
               "<p>Nothing is known of its error: one sample a pixel, a black image, or sums beyond single "
               "precision.</p></body></html>\n";
    page += fmt::format(
        "<p>By root mean square it is off by <b>{}</b> of its mean brightness ({} to {}, 19 times in 20). {}</p>\n",
        formatPercent(error.estimate->rms.value), formatPercent(error.estimate->rms.lower),
        formatPercent(error.estimate->rms.upper),
        error.isTrusted() ? "No check speaks against that."
                          : "<span class=failed>That cannot be trusted yet: see the checks that failed.</span>");
    page += "<section><h2>Estimates</h2>\n" + estimates(*error.estimate) + "</section>\n";
    if (const std::string plot = curve(error); !plot.empty())
        page += "<section><h2>Error against time</h2>\n" + plot + "</section>\n";
    page += "<section><h2>Can it be trusted?</h2>\n" + checksTable(error.checks) + "</section>\n";
    return page + "</body></html>\n";
}

}  // namespace parhelion::app

// A row per case, the fastest first: its name, its time on a logarithmic axis with the interval, and in
// figures. Cases without a time follow, with their status.

const kRowHeight = matchMedia("(max-width: 640px), (pointer: coarse)").matches ? 32 : 20;  // for fingers, as in report.css

// chart: kind, title, machine, x {domain, ticks, format}, cases.
function drawRows(container, chart) {
  container.replaceChildren(titleOf(chart));
  if (!chart.cases.length) {
    container.append(element("p", { class: "empty" }, "Not run on this machine."));
    return;
  }
  const timeOf = (c) => (isTimed(c) ? c[view.measure] : Infinity);
  const rows = chart.cases.slice().sort((a, b) => timeOf(a) - timeOf(b));
  const width = Math.max(260, container.clientWidth);
  const longest = d3.max(rows, (c) => nameOf(c).length);
  const margin = { left: Math.min(width * 0.45, 14 + 6.6 * longest), right: 60, top: 4, bottom: 20 };
  const height = margin.top + margin.bottom + kRowHeight * rows.length;
  const x = d3.scaleLog(chart.x.domain, [margin.left, width - margin.right]);
  const svg = d3.create("svg").attr("viewBox", `0 0 ${width} ${height}`).attr("role", "group")
    .attr("aria-label", `${chart.kind}, ${chart.title}, ${machines[chart.machine].name}`);
  for (const tick of spaced(chart.x.ticks, x, 50)) {
    svg.append("path").attr("class", "grid").attr("d", `M${x(tick)},${margin.top}V${height - margin.bottom}`);
    axisText(svg, x(tick), height - 8, "middle", chart.x.format(tick));
  }
  const targets = rows.map((testCase, i) => {
    const y = margin.top + kRowHeight * (i + 0.5);
    const style = styles.get(testCase.variant);
    const group = svg.append("g").attr("class", "series").attr("data-variant", testCase.variant);
    group.append("text").attr("class", "row-name").attr("x", margin.left - 10).attr("y", y).attr("dy", "0.32em")
      .attr("text-anchor", "end").text(shortened(nameOf(testCase), (margin.left - 14) / 6.6));
    return { node: drawTime(group, testCase, style, y), at: [margin.left, y], across: true, series: "",
             cases: [testCase], lines: caseLines(testCase) };
  });
  container.append(svg.node());
  addInteraction(svg.node(), targets);

  function drawTime(group, testCase, style, y) {
    if (!isTimed(testCase)) {
      const mark = ownProperty(kStatusMarks, testCase.status) || "!";
      return group.append("text").attr("class", `gap ${testCase.status}`).attr("x", margin.left).attr("y", y)
        .attr("dy", "0.32em").text(`${mark} ${testCase.status}`).node();
    }
    if (hasInterval(testCase)) {
      const inside = (value) => Math.min(width - margin.right, Math.max(margin.left, x(value)));
      group.append("path").attr("class", "interval").style("stroke", style.colour)
        .attr("d", `M${testCase.ci95_low_seconds > 0 ? inside(testCase.ci95_low_seconds) : margin.left},${y}H${inside(testCase.ci95_high_seconds)}`);
    }
    axisText(group, width, y, "end", time(testCase[view.measure]));
    return drawSymbol(group, style).attr("transform", `translate(${x(testCase[view.measure])},${y})`).node();
  }
}

const shortened = (text, length) => (text.length > length ? `${text.slice(0, Math.floor(length) - 1)}…` : text);

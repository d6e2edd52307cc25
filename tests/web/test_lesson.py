"""The lesson in a browser."""

#: The pairs of a figure's boxes, by brute force.
BRUTE_FORCE = """
const brute = (figure) => {
  const found = [];
  const { bodies } = figure;
  for (let a = 0; a < bodies.length; ++a) {
    for (let b = a + 1; b < bodies.length; ++b) {
      const near = (axis, extent) => Math.abs(bodies[a][axis] - bodies[b][axis])
        <= (bodies[a][extent] + bodies[b][extent]) / 2;
      if (near("x", "width") && near("y", "height")) found.push(`${a} ${b}`);
    }
  }
  return found.sort();
};
"""


def open_lesson(page):
    page.driver.get(page.address + "lesson.html")
    page.wait("window.figures?.every((figure) => figure.caption.textContent)")


def test_every_figure_finds_the_pairs(page):
    open_lesson(page)
    wrong = page.driver.execute_script(
        BRUTE_FORCE
        + """
        return figures.filter((figure) => {
          for (let frame = 0; frame < 200; ++frame) {
            figure.move();
            figure.run();
          }
          const answer = figure.answer.overlapping.map(([a, b]) => `${a} ${b}`).sort();
          return JSON.stringify(answer) !== JSON.stringify(brute(figure));
        }).map((figure) => figure.algorithm);
        """
    )
    assert wrong == []
    drawn = page.driver.execute_script(
        "return figures.map(({answer}) => answer.cells.length + answer.lines.length)"
    )
    assert drawn[0] == 0 and all(drawn[1:]), "brute force has no structure, all others have"
    assert page.complaints() == []


def test_sliders_change_boxes_and_cells(page):
    open_lesson(page)
    page.driver.execute_script(
        """
        window.set = (figure, name, value) => {
          const input = figure.node.querySelector(`[name="${name}"]`);
          input.value = value;
          input.dispatchEvent(new Event("input"));
        };
        set(figures[2], "boxes", 300);
        """
    )
    assert page.driver.execute_script("return figures[2].bodies.length") == 300
    cells = "figures[2].answer.cells.length"
    few = page.driver.execute_script(f"set(figures[2], 'boxes per cell', 60); return {cells}")
    many = page.driver.execute_script(f"set(figures[2], 'boxes per cell', 2); return {cells}")
    assert few < many


def test_a_box_is_dragged_onto_another(page):
    open_lesson(page)
    places = page.driver.execute_script(
        """
        const [figure] = figures;
        figure.speed = 0;
        figure.canvas.scrollIntoView({ block: "center" });
        Object.assign(figure.bodies.at(-1), { x: 3, y: 3 });
        Object.assign(figure.bodies.at(-2), { x: 9, y: 7 });
        const box = figure.canvas.getBoundingClientRect();
        const scale = box.width / 16;
        return figure.bodies.slice(-2).map(({ x, y }) => [box.left + x * scale, box.top + y * scale]);
        """
    )
    page.drag(places[1], places[0])
    page.wait("figures[0].answer.overlapping.some(([a, b]) => a === 58 && b === 59)")

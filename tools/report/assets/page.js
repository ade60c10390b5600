// Draws every chart of the page: specification + data + signals, at the width of its place.
(() => {
  "use strict";
  const vega = chaintrueModules;
  const transforms = vega["vega-dataflow"].transforms;
  for (const name of ["vega-transforms", "vega-view-transforms", "vega-encode"]) Object.assign(transforms, vega[name]);

  const read = (id) => JSON.parse(document.getElementById(id).textContent);
  const tip = document.getElementById("tip");

  const soft = {labelColor: "#5b6675", labelFontSize: 11, titleColor: "#5b6675", titleFontSize: 12, titleFontWeight: "normal"};
  const look = {
    font: "system-ui, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif",
    axis: {...soft, domainColor: "#d9dee5", tickColor: "#d9dee5", gridColor: "#eef1f4"},
    legend: soft,
  };

  // A tooltip is an object: "title" heads it, every other key is a row.
  function show_tip(handler, event, item, value) {
    if (value === null || value === undefined || value === "") {
      tip.style.display = "none";
      return;
    }
    tip.textContent = "";
    const head = document.createElement("b");
    head.textContent = value.title;
    const rows = document.createElement("dl");
    for (const [key, text] of Object.entries(value)) {
      if (key === "title") continue;
      rows.appendChild(document.createElement("dt")).textContent = key;
      rows.appendChild(document.createElement("dd")).textContent = text;
    }
    tip.append(head, rows);
    tip.style.display = "block";
    const right = window.scrollX + document.documentElement.clientWidth - tip.offsetWidth - 8;
    tip.style.left = `${Math.max(8, Math.min(event.pageX + 14, right))}px`;
    tip.style.top = `${event.pageY + 18}px`;
  }

  // Gives the specification's declared tables and signals their values; a name it does not declare is an error.
  function filled(specification, chart) {
    const spec = JSON.parse(JSON.stringify(specification));
    const place = (list, name, what) => {
      const found = list.find((entry) => entry.name === name);
      if (!found) throw new Error(`${chart.spec}: no ${what} is named ${name}`);
      return found;
    };
    for (const [name, rows] of Object.entries(chart.data)) place(spec.data, name, "data table").values = rows;
    for (const [name, value] of Object.entries(chart.signals)) place(spec.signals, name, "signal").value = value;
    return spec;
  }

  async function draw(chart, specification) {
    const canvas = document.getElementById(chart.id);
    try {
      const spec = filled(specification, chart);
      // Folded away a chart has no width of its own yet: it is drawn anew once it is opened.
      spec.width = canvas.clientWidth || 600;
      const view = new vega["vega-view"].View(vega["vega-parser"].parse(spec, look), {
        renderer: "svg", container: canvas, hover: true, tooltip: show_tip,
      });
      await view.runAsync();
      let width = canvas.clientWidth;
      new ResizeObserver(() => {
        if (canvas.clientWidth === width || canvas.clientWidth === 0) return;
        width = canvas.clientWidth;
        view.width(width).runAsync();
      }).observe(canvas);
    } catch (error) {
      canvas.classList.add("failed");
      canvas.textContent = `This chart could not be drawn: ${error.message}`;
      console.error(`${chart.spec}: ${error.message}`);
    }
  }

  const specifications = read("specifications");
  Promise.all(read("data").charts.map((chart) => draw(chart, specifications[chart.spec]))).then(() => {
    document.documentElement.dataset.charts = "drawn";
  });
})();

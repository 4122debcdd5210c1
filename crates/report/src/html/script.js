// The table of operations: baseline, figures, filters and order. Without this script, the table shows
// ratios to the fastest.
// Warnings and long tables are printed whole.
addEventListener('beforeprint', () => {
  for (const details of document.querySelectorAll('main > :not(#meshes) details:not(.folded, .folded *), .warnings')) {
    if (!details.previousElementSibling?.matches('figure')) details.open = true;
  }
});

// The numbers of each figure as CSV.
for (const figure of document.querySelectorAll('figure[data-figure]')) {
  const table = figure.parentElement.querySelector('table');
  if (!table) continue;
  const button = document.createElement('button');
  button.type = 'button';
  button.className = 'csv';
  button.textContent = `${figure.dataset.figure}.csv`;
  button.addEventListener('click', () => {
    const quoted = (cell) => `"${cell.textContent.replaceAll('"', '""')}"`;
    const lines = [...table.rows].map((row) => [...row.cells].map(quoted).join(',') + '\r\n');
    const link = document.createElement('a');
    link.href = URL.createObjectURL(new Blob(lines, {type: 'text/csv'}));
    link.download = button.textContent;
    link.click();
    URL.revokeObjectURL(link.href);
  });
  figure.querySelector('.source').append(' · numbers: ', button);
}

(() => {
  const table = document.querySelector('#operations table');
  if (!table) return;
  const controls = document.querySelector('#operations .controls');
  const baseline = controls.querySelector('[name=baseline]');
  const figures = controls.querySelector('[name=figures]');
  const group = controls.querySelector('[name=group]');
  const search = controls.querySelector('[name=search]');
  const status = controls.querySelector('output');
  const body = table.tBodies[0];
  const rows = [...body.rows].map((row, place) => ({
    row, place, name: row.dataset.operation, group: row.dataset.group,
    cells: [...row.cells].slice(1).map((cell) => {
      const number = (name) => (cell.dataset[name] === undefined ? null : Number(cell.dataset[name]));
      return {
        cell, backend: cell.dataset.backend, bound: cell.dataset.source === 'bound',
        ns: number('ns'), low: number('low'), high: number('high'), ratio: number('ratio'),
        // The ratio to each backend, with its interval.
        quotients: (cell.dataset.to ?? '').split(',').map((text) => text.split(' ').filter(Boolean).map(Number)),
        samples: (cell.dataset.samples ?? '').split(' ').slice(1).map((launch) =>
          launch.split(',').map((longer) => Number(cell.dataset.samples.split(' ')[0]) * (1 + Number(longer) / 1000))),
        from: Number(cell.dataset.from), to: Number(cell.dataset.until), plain: cell.innerHTML, shown: null,
      };
    }),
  }));

  // Three significant digits, as in the figures.
  const digits = (number, round = Math.round) => {
    if (!Number.isFinite(number)) return '–';
    if (number === 0) return '0';
    const power = Math.floor(Math.log10(Math.abs(number))) - 2;
    const rounded = power < 0
      ? round(number * 10 ** -power + 1e-9) / 10 ** -power
      : round(number / 10 ** power + 1e-9) * 10 ** power;
    const places = Math.max(0, 2 - Math.floor(Math.log10(Math.abs(rounded))));
    return rounded.toLocaleString('en-US', {minimumFractionDigits: places, maximumFractionDigits: places});
  };
  const units = [['ns', 1], ['µs', 1e3], ['ms', 1e6], ['s', 1e9]];
  const duration = (ns, round) => {
    const [unit, size] = units.find(([, size]) => Number(digits(ns).replaceAll(',', '')) < 1e3 * size) ?? units.at(-1);
    return `${digits(ns / size, round)} ${unit}`;
  };
  // The scale goes from 1 to 10, or from 1/10 to 10 about another baseline.
  let start = 1;
  const place = (ratio) => Math.min(1, Math.max(0, Math.log10(ratio / start) / Math.log10(10 / start)));
  const setDot = (cell, ratio, low, high) => {
    cell.style.setProperty('--at', place(ratio));
    cell.style.setProperty('--from', low ? place(low) : 0);
    cell.style.setProperty('--to', low ? place(high) : 0);
    cell.classList.toggle('over', ratio > 10);
    cell.classList.toggle('under', ratio < start);
    cell.classList.toggle('dot', true);
  };
  const reading = table.querySelector('.reading');
  const plainReading = reading.textContent;
  const scale = table.querySelector('.scale');
  const cellHtml = (text, small) => `${text}${small ? `<small>${small}</small>` : ''}`;

  const draw = () => {
    reading.textContent = figures.value === 'times'
      ? 'Time for each element, with its 95 % interval where there are enough samples.'
      : baseline.value === '' ? plainReading
        : `Time divided by that of ${baseline.value}, with the 95 % interval of this ratio.`;
    start = figures.value === 'times' || baseline.value === '' ? 1 : 0.1;
    table.style.setProperty('--start', place(1));
    scale.textContent = start === 1 ? 'from 1 to 10' : 'from 1/10 to 10, with a line at 1';
    for (const {cells} of rows) {
      const column = cells.findIndex(({backend}) => backend === baseline.value);
      const base = cells[column];
      const fastest = baseline.value === '';
      const shortest = Math.min(...cells.filter(({ns, bound}) => ns !== null && !bound).map(({ns}) => ns));
      for (const entry of cells) {
        const {cell, ns, low, high, bound} = entry;
        entry.shown = ns;
        if (ns === null) continue;
        const sign = bound ? '≥ ' : cell.dataset.source === 'sampled' ? '~ ' : '';
        const round = bound ? Math.floor : Math.round;
        if (figures.value === 'times') {
          const ends = low === null ? '' : `${duration(low)} to ${duration(high)}`;
          cell.innerHTML = cellHtml(sign + duration(ns, round), ends);
          setDot(cell, ns / shortest, low / shortest, high / shortest);
        } else if (fastest) {
          cell.innerHTML = entry.plain;
          if (entry.ratio !== null) setDot(cell, entry.ratio, entry.from, entry.to);
          entry.shown = entry.ratio ?? ns;
        } else if (!base || base.ns === null || base.bound) {
          cell.textContent = '–';
          cell.classList.remove('dot', 'over', 'under');
          entry.shown = null;
        } else {
          // A lower bound has no ratio of its own.
          const both = entry.ratio !== null && base.ratio !== null;
          const [ratio = both ? entry.ratio / base.ratio : ns / base.ns, from, to] = entry.quotients[column] ?? [];
          entry.shown = ratio;
          const ends = entry === base || from === undefined ? '' : `${digits(from)} to ${digits(to)}`;
          cell.innerHTML = cellHtml(`${sign}${digits(ratio, round)} ×`, ends);
          setDot(cell, ratio, ends && from, to);
        }
      }
    }
  };

  const filter = () => {
    close();
    const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
    let visible = 0;
    for (const {row, name, group: own} of rows) {
      const text = `${own} ${row.cells[0].textContent}`.toLowerCase();
      row.hidden = !(group.value === '' || own === group.value) || !words.every((word) => text.includes(word));
      visible += !row.hidden;
    }
    status.textContent = `${visible} of ${rows.length} operations`;
  };

  // The samples of an operation: a line of ticks for each launch, on one logarithmic axis for all columns.
  const NAMES = 130, LENGTH = 460, LAUNCH = 5, TOP = 22;
  const samplesOf = ({name, cells}) => {
    const known = cells.filter(({samples}) => samples.length);
    const all = known.flatMap(({samples}) => samples.flat());
    const [least, most] = [Math.min(...all), Math.max(...all) * 1.001];
    const across = (ns) => (NAMES + LENGTH * Math.log(ns / least) / Math.log(most / least)).toFixed(1);
    let y = TOP;
    const lines = known.map(({cell: {dataset: {backend}}, samples}) => {
      const middle = y + samples.length * LAUNCH / 2 + 4;
      const ticks = samples.map((launch, nth) => `<path stroke="var(--link)" d="${launch.map((ns) =>
        `M${across(ns)} ${y + nth * LAUNCH}v${LAUNCH - 1}`).join('')}"><title>${backend}, launch ${nth + 1}: ${
        launch.length} samples, ${duration(Math.min(...launch))} to ${duration(Math.max(...launch))}</title></path>`);
      y += Math.max(16, samples.length * LAUNCH + 8);
      return `<text x="${NAMES - 8}" y="${middle}" text-anchor="end">${backend}</text>${ticks.join('')}`;
    });
    const label = `The samples of ${name} by launch`;
    return `<div class="scroll" tabindex="0" role="region" aria-label="Figure: ${label}"><svg role="img" aria-label="${label}"
      width="${NAMES + LENGTH + 40}" height="${y}" font-size="12" fill="currentColor"><title>${label}</title><desc>Each tick is a sample,
      each line of ticks a launch; the axis is logarithmic.</desc><text x="${NAMES}" y="12">${duration(least)}</text><text
      x="${NAMES + LENGTH}" y="12" text-anchor="end">${duration(most)}</text>${lines.join('')}</svg></div>`;
  };
  const close = () => {
    for (const opened of body.querySelectorAll('.samples')) opened.remove();
    for (const button of body.querySelectorAll('[aria-expanded]')) button.setAttribute('aria-expanded', false);
  };
  for (const entry of rows) {
    if (!entry.cells.some(({samples}) => samples.length)) continue;
    const button = document.createElement('button');
    button.type = 'button';
    button.setAttribute('aria-expanded', false);
    const header = entry.row.cells[0];
    button.append(header.firstChild);
    header.prepend(button);
    button.addEventListener('click', () => {
      const isOpen = button.getAttribute('aria-expanded') === 'true';
      close();
      if (isOpen) return;
      button.setAttribute('aria-expanded', true);
      const opened = document.createElement('tr');
      opened.className = 'samples';
      opened.innerHTML = `<td colspan="${entry.cells.length + 1}">${samplesOf(entry)}</td>`;
      entry.row.after(opened);
    });
  }

  const headers = [...table.tHead.rows[0].cells];
  let sorted = {column: -1, down: false};
  const sort = () => {
    const {column, down} = sorted;
    const value = ({cells, name}) => (column === 0 ? name : cells[column - 1].shown);
    const order = [...rows].sort((a, b) => {
      if (column < 0) return a.place - b.place;
      const [x, y] = [value(a), value(b)];
      // Operations without a figure are last in both directions.
      if (x === null || y === null) return (x === null) - (y === null) || a.place - b.place;
      const sign = down ? -1 : 1;
      return sign * (typeof x === 'string' ? x.localeCompare(y) : x - y) || a.place - b.place;
    });
    close();
    body.append(...order.map(({row}) => row));
    table.classList.toggle('sorted', column >= 0);
    headers.forEach((header, place) => {
      header.setAttribute('aria-sort', place !== column ? 'none' : down ? 'descending' : 'ascending');
    });
  };
  headers.forEach((header, column) => {
    const button = document.createElement('button');
    button.type = 'button';
    button.append(...header.childNodes);
    header.append(button);
    button.addEventListener('click', () => {
      // Up, down, and the order of the study again.
      if (sorted.column !== column) sorted = {column, down: false};
      else if (!sorted.down) sorted = {column, down: true};
      else sorted = {column: -1, down: false};
      sort();
    });
  });
  for (const control of [baseline, figures]) {
    control.addEventListener('change', () => { draw(); sort(); });
  }
  for (const control of [group, search]) control.addEventListener('input', filter);
  controls.hidden = false;
  const hint = document.querySelector('#operations .hint');
  if (hint) hint.hidden = false;
  draw();
  sort();
  filter();
})();

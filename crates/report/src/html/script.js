// The table of operations: baseline, figures, filters and order. Without this script, the table shows
// ratios to the fastest.
// Warnings and long tables are printed whole.
addEventListener('beforeprint', () => {
  for (const details of document.querySelectorAll('main > :not(#meshes) details:not(.folded, .folded *), .warnings')) {
    if (!details.previousElementSibling?.matches('figure')) details.open = true;
  }
});

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
        to: (cell.dataset.to ?? '').split(',').map((text) => text.split(' ').filter(Boolean).map(Number)),
        plain: cell.innerHTML, shown: null,
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
  // A bar that is too long has a gap; empty and dashed bars have none.
  const setBar = (cell, ratio) => {
    cell.style.setProperty('--share', length(ratio));
    cell.classList.toggle('over', ratio > 10 && cell.dataset.source === 'measured');
  };
  const length = (ratio) => Math.min(1, Math.max(0, Math.log10(ratio)));
  const reading = table.querySelector('.reading');
  const plainReading = reading.textContent;
  const cellHtml = (text, small) => `${text}${small ? `<small>${small}</small>` : ''}`;

  const draw = () => {
    reading.textContent = figures.value === 'times'
      ? 'Time for each element, with its 95 % interval where there are enough samples.'
      : baseline.value === '' ? plainReading
        : `Time divided by that of ${baseline.value}, with the 95 % interval of this ratio.`;
    for (const {cells} of rows) {
      const place = cells.findIndex(({backend}) => backend === baseline.value);
      const base = cells[place];
      const fastest = baseline.value === '';
      const shortest = Math.min(...cells.filter(({ns, bound}) => ns !== null && !bound).map(({ns}) => ns));
      for (const entry of cells) {
        const {cell, ns, low, high, bound} = entry;
        entry.shown = ns;
        if (ns === null) continue;
        const sign = bound ? '≥ ' : '';
        const round = bound ? Math.floor : Math.round;
        if (figures.value === 'times') {
          const ends = low === null ? '' : `${duration(low)} to ${duration(high)}`;
          cell.innerHTML = cellHtml(sign + duration(ns, round), ends);
          setBar(cell, ns / shortest);
        } else if (fastest) {
          cell.innerHTML = entry.plain;
          if (entry.ratio !== null) setBar(cell, entry.ratio);
          entry.shown = entry.ratio ?? ns;
        } else if (!base || base.ns === null || base.bound) {
          cell.textContent = '–';
          setBar(cell, 1);
          entry.shown = null;
        } else {
          // A lower bound has no ratio of its own.
          const [ratio = ns / base.ns, from, to] = entry.to[place] ?? [];
          entry.shown = ratio;
          const ends = entry === base || from === undefined ? '' : `${digits(from)} to ${digits(to)}`;
          cell.innerHTML = cellHtml(`${sign}${digits(ratio, round)} ×`, ends);
          setBar(cell, ns / shortest);
        }
      }
    }
  };

  const filter = () => {
    const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
    let visible = 0;
    for (const {row, name, group: own} of rows) {
      const text = `${own} ${row.cells[0].textContent}`.toLowerCase();
      row.hidden = !(group.value === '' || own === group.value) || !words.every((word) => text.includes(word));
      visible += !row.hidden;
    }
    status.textContent = `${visible} of ${rows.length} operations`;
  };

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
  draw();
  sort();
  filter();
})();

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
  figure.querySelector('figcaption').append(' Numbers: ', button);
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
  const headers = [...table.tHead.rows[0].cells];
  const backends = headers.slice(1).map((header) => header.textContent);
  const body = table.tBodies[0];
  const value = (text) => Number(text.replaceAll(',', ''));
  const rows = [...body.rows].map((row, place) => ({
    row, place, name: row.dataset.operation, group: row.dataset.group,
    cells: [...row.cells].slice(1).map((cell, column) => {
      const {ns = '', ratio, to = '', samples = ''} = cell.dataset;
      const [shortest, ...launches] = samples.split(' ');
      return {
        cell, backend: backends[column],
        // The time and the ends of its interval.
        times: ns.split(' ').filter(Boolean).map(Number),
        ratio: ratio && Number(ratio),
        // The ratio to each backend and the ends of its interval, as they are shown.
        quotients: to.split('|').map((quotient) => quotient.split(' ')),
        // The samples of each launch that has some, with its number.
        samples: launches.map((launch, number) => ({number,
          times: launch === '-' ? [] : launch.split(',').map((longer) => shortest * (1 + longer / 1000))}))
          .filter(({times}) => times.length),
        plain: {html: cell.innerHTML, classes: cell.className, style: cell.style.cssText}, shown: null,
      };
    }),
  }));

  // With three significant digits.
  const units = [['s', 1e9], ['ms', 1e6], ['µs', 1e3], ['ns', 1]];
  const duration = (ns) => {
    const [unit, size] = units.find(([, size]) => ns >= 0.9995 * size) ?? units.at(-1);
    return `${(ns / size).toLocaleString('en-US', {minimumSignificantDigits: 3, maximumSignificantDigits: 3})} ${unit}`;
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
  };
  const reading = table.querySelector('.reading');
  const plainReading = reading.textContent;
  const scale = table.querySelector('.scale');
  const cellHtml = (text, small) => `${text}${small ? `<small>${small}</small>` : ''}`;
  const column = () => backends.indexOf(baseline.value);

  const draw = () => {
    reading.textContent = figures.value === 'times'
      ? `${reading.dataset.time} for each element. The dots are ratios to the fastest.`
      : baseline.value === '' ? plainReading
        : `${reading.dataset.time} divided by that of ${baseline.value}, with ${reading.dataset.ends}.`;
    baseline.disabled = figures.value === 'times';
    start = figures.value === 'times' || baseline.value === '' ? 1 : 0.1;
    table.style.setProperty('--start', place(1));
    scale.textContent = start === 1 ? 'from 1 to 10' : 'from 1/10 to 10, with a line at 1';
    for (const {cells} of rows) {
      const measured = cells.filter(({cell, times}) => times.length && !cell.classList.contains('bound'));
      const shortest = Math.min(...measured.map(({times: [ns]}) => ns));
      for (const entry of cells) {
        const {cell, times, ratio, plain} = entry;
        cell.innerHTML = plain.html;
        cell.className = plain.classes;
        cell.style.cssText = plain.style;
        entry.shown = ratio ?? null;
        if (!times.length) continue;
        if (figures.value === 'times') {
          cell.innerHTML = cellHtml(cell.dataset.time, cell.dataset.ends);
          setDot(cell, ...times.map((ns) => ns / shortest));
          entry.shown = times[0];
        } else if (baseline.value !== '') {
          const [text, low, high] = entry.quotients[column()] ?? [];
          entry.shown = text ? value(text) : null;
          if (text) {
            cell.innerHTML = cellHtml(`${cell.dataset.sign ?? ''}${text} ×`, low && `${low} to ${high}`);
            setDot(cell, value(text), low && value(low), high && value(high));
          } else {
            cell.innerHTML = cellHtml('–', `no time of ${baseline.value}`);
            cell.classList.remove('dot', 'over', 'under');
          }
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

  // The samples of an operation: a line of ticks for each launch, on one logarithmic axis for all columns that are at
  // most ten times slower than the fastest. On an axis with all, the ticks of each would be one.
  const NAMES = 130, LENGTH = Math.min(560, Math.max(160, innerWidth - NAMES - 70)), LAUNCH = 6, TOP = 22;
  const samplesOf = ({name, cells}) => {
    const known = cells.filter(({samples}) => samples.length).map(({backend, samples}) => {
      const all = samples.flatMap(({times}) => times);
      return {backend, samples, all, least: Math.min(...all), most: Math.max(...all)};
    });
    const least = Math.min(...known.map((column) => column.least));
    const isNear = (column) => column.least <= 10 * least;
    const most = Math.max(...known.filter(isNear).map((column) => column.most)) * 1.001;
    const across = (ns) => (NAMES + LENGTH * Math.log(ns / least) / Math.log(most / least)).toFixed(1);
    let y = TOP;
    const lines = known.map((column) => {
      const {backend, samples, all} = column;
      const range = (times) => `${duration(Math.min(...times))} to ${duration(Math.max(...times))}`;
      const height = isNear(column) ? Math.max(16, samples.length * LAUNCH + 8) : 18;
      const middle = y + (height - 8) / 2 + 4;
      const marks = isNear(column)
        ? samples.map(({number, times}, nth) => `<path stroke="var(--link)" stroke-width="2" stroke-opacity=".6" d="${times.map((ns) =>
          `M${across(ns)} ${y + nth * LAUNCH}v${LAUNCH - 1}`).join('')}"><title>${backend}, launch ${number}: ${
          times.length} ${times.length === 1 ? 'sample' : 'samples'}, ${range(times)}</title></path>`).join('')
        : `<text x="${NAMES + LENGTH}" y="${middle}" text-anchor="end">beyond: ${range(all)} →</text>`;
      y += height;
      return `<text x="${NAMES - 8}" y="${middle}" text-anchor="end">${backend}</text>${marks}`;
    });
    const label = `The samples of ${name} by launch`;
    const about = 'Each tick is a sample, each line of ticks a launch; the axis is logarithmic. The time of the table is corrected for slow ' +
      'and fast launches.';
    return `<div class="scroll" tabindex="0" role="region" aria-label="Figure: ${label}"><svg role="img" aria-label="${label}"
      width="${NAMES + LENGTH + 40}" height="${y}" font-size="12" fill="currentColor"><title>${label}</title><desc>${about}</desc><text
      x="${NAMES}" y="12">${duration(least)}</text><text x="${NAMES + LENGTH}" y="12" text-anchor="end">${
      duration(most)}</text>${lines.join('')}</svg></div><small>${about}</small>`;
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

  let sorted = {column: -1, down: false};
  const sort = () => {
    const {column, down} = sorted;
    const key = ({cells, name}) => (column === 0 ? name : cells[column - 1].shown);
    const order = [...rows].sort((a, b) => {
      if (column < 0) return a.place - b.place;
      const [x, y] = [key(a), key(b)];
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

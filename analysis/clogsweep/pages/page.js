"use strict";
// The page can be read without this script: all numbers are in the table, and points have titles.

const table = document.querySelector("table");
const headings = [...table.tHead.rows[0].cells];
const card = document.getElementById("card");

// A point of a chart shows its row of the table.

function meaning(cell) {
  const doubts = [...cell.querySelectorAll("abbr")];
  return doubts.length ? doubts.map(doubt => doubt.title).join("; ") : cell.textContent;
}

function pick(group) {
  for (const element of document.querySelectorAll(".of")) element.classList.remove("of");
  for (const element of document.querySelectorAll(`[data-groups~="${group}"]`)) element.classList.add("of");
  document.body.classList.add("picked");
}

let shown = null;

function show(point) {
  if (point === shown) return;
  shown = point;
  const group = point.dataset.groups;
  const row = table.querySelector(`tr[data-groups="${group}"]`);
  const list = document.createElement("dl");
  for (const cell of row.cells) {
    if (!cell.textContent) continue;
    const name = document.createElement("dt"), value = document.createElement("dd");
    name.append(...headings[cell.cellIndex].firstChild.cloneNode(true).childNodes);
    value.textContent = meaning(cell);
    list.append(name, value);
  }
  pick(group);
  card.replaceChildren(list);
  card.hidden = false;
}

/** Beside a place on the screen, where there is room. */
function moveCard(x, y) {
  const room = 14, {width, height} = card.getBoundingClientRect();
  const left = x + room + width < innerWidth ? x + room : x - room - width;
  const top = y + room + height < innerHeight ? y + room : y - room - height;
  card.style.left = `${Math.max(4, left)}px`;
  card.style.top = `${Math.max(4, top)}px`;
}

function hide() {
  if (!shown) return;
  shown = null;
  card.hidden = true;
  document.body.classList.remove("picked");
  for (const element of document.querySelectorAll(".of")) element.classList.remove("of");
}

/** The point at a place; where points overlap, the one whose middle is nearest. */
function pointAt(x, y) {
  const distance = point => {
    const {left, right, top, bottom} = point.getBoundingClientRect();
    return point.matches(".line") ? Infinity : Math.hypot((left + right) / 2 - x, (top + bottom) / 2 - y);
  };
  const found = document.elementsFromPoint(x, y).map(element => element.closest(".point")).filter(point => point);
  return found.length ? found.reduce((best, point) => distance(point) < distance(best) ? point : best) : null;
}

document.addEventListener("pointermove", event => {
  const point = pointAt(event.clientX, event.clientY);
  if (point) {
    show(point);
    moveCard(event.clientX, event.clientY);
  } else if (!document.activeElement.matches(".point")) {
    hide();
  }
});
for (const point of document.querySelectorAll(".point")) {
  point.querySelector("title").remove();  // the browser would show it over the card
  point.addEventListener("focus", () => {
    const {right, bottom} = point.getBoundingClientRect();
    show(point);
    moveCard(right, bottom);
  });
  point.addEventListener("blur", hide);
}
document.addEventListener("keydown", event => { if (event.key === "Escape") hide(); });

// A heading sorts the table: by numbers if the column begins with them ("> 9.56" is one), otherwise by words.

function sortedBy(rows, column) {
  const keys = new Map(rows.map(row => [row, row.cells[column].textContent]));
  const numbers = new Map([...keys].map(([row, text]) => [row, text === "-" ? Infinity : parseFloat(text.replace(/^> /, ""))]));
  const isNumeric = ![...numbers.values()].some(Number.isNaN);
  const difference = (a, b) => numbers.get(a) === numbers.get(b) ? 0 : numbers.get(a) - numbers.get(b);
  return [...rows].sort(isNumeric ? difference : (a, b) => keys.get(a).localeCompare(keys.get(b)));
}

for (const heading of headings) {
  const button = document.createElement("button");
  button.append(...heading.childNodes);
  heading.append(button);
  heading.setAttribute("aria-sort", "none");
  button.addEventListener("click", () => {
    const isUp = heading.getAttribute("aria-sort") !== "ascending";
    for (const other of headings) other.setAttribute("aria-sort", "none");
    heading.setAttribute("aria-sort", isUp ? "ascending" : "descending");
    const rows = sortedBy([...table.tBodies[0].rows], heading.cellIndex);
    table.tBodies[0].append(...(isUp ? rows : rows.reverse()));
  });
}

/* Names the columns of wide tables in their cells, for phones (site.css). */
document.addEventListener("DOMContentLoaded", () => {
  const fewest = 3; // columns; narrower tables fit
  document.querySelectorAll("table.docutils").forEach((table) => {
    const names = [...table.querySelectorAll("thead th")].map((head) => head.textContent.trim());
    if (names.length < fewest) return;
    table.classList.add("stacked");
    table.querySelectorAll("tbody tr").forEach((row) => [...row.children].forEach((cell, index) => {
      if (index > 0 && cell.textContent.trim()) cell.dataset.column = names[index];
    }));
  });
});

/* Search results quote the text of pages. Formulas in it are TeX: write them as plain text instead. */
(() => {
  const letters = {
    alpha: "α", beta: "β", gamma: "γ", Gamma: "Γ", delta: "δ", Delta: "Δ", zeta: "ζ", theta: "θ", kappa: "κ",
    lambda: "λ", mu: "μ", pi: "π", rho: "ρ", sigma: "σ", tau: "τ", phi: "φ", chi: "χ", omega: "ω", infty: "∞",
    le: "≤", ge: "≥", approx: "≈", times: "×", cdot: "·", pm: "±", circ: "°", to: "→", sqrt: "√", partial: "∂",
    propto: "∝", ll: "≪", gg: "≫", sum: "Σ", int: "∫", dots: "…", ldots: "…", sim: "~", quad: " ", qquad: " ",
  };
  const plain = (tex) => tex
    .replace(/^\s*\\[([]|\\[)\]]\s*$/g, "")
    .replace(/\\(?:mathrm|text|mathbf|mathit|operatorname|left|right|bigl?|bigr?|tfrac|dfrac|frac)(?![A-Za-z])/g, "")
    .replace(/\\begin\{.*?\}|\\end\{.*?\}|\\\\|&/g, " ")
    .replace(/\\([A-Za-z]+)/g, (_, name) => letters[name] ?? name)
    .replace(/\\[,;!: ]|~/g, " ")
    .replace(/[{}\\]/g, "");
  const plainTitle = (title) => title.replace(/\\\((.*?)\\\)/g, (_, tex) => plain(tex));
  const mendTitles = (index) => {
    index.titles = index.titles.map(plainTitle);
    index.alltitles = Object.fromEntries(Object.entries(index.alltitles).map(([title, places]) => [plainTitle(title), places]));
  };
  const mend = () => {
    if (Search._index) mendTitles(Search._index);
    const toText = Search.htmlToText;
    Search.htmlToText = (html) => {
      const page = new DOMParser().parseFromString(html, "text/html");
      page.querySelectorAll(".math").forEach((formula) => { formula.textContent = plain(formula.textContent); });
      page.querySelectorAll("script, style").forEach((part) => part.remove());
      return toText(page.documentElement.outerHTML);
    };
  };
  // Sphinx's script comes behind this one, and begins to search when the page is complete.
  document.addEventListener("DOMContentLoaded", mend);
})();

"use strict";
(() => {
  const articles = [...document.querySelectorAll("article")];
  const links = [...document.querySelectorAll("#contents a")];
  const words = document.getElementById("words");
  const hits = document.getElementById("hits");
  const contents = document.getElementById("contents");

  // One document at a time; an address names a document, or a heading in it.
  function show() {
    const goal = document.getElementById(decodeURIComponent(location.hash.slice(1))) || articles[0];
    const article = goal.closest("article");
    for (const other of articles) other.classList.toggle("shown", other === article);
    for (const link of links) {
      if (link.hash === "#" + article.id) link.setAttribute("aria-current", "page");
      else link.removeAttribute("aria-current");
    }
    document.title = article.dataset.title + " - chaintrue";
    if (goal === article) window.scrollTo(0, 0);
    else goal.scrollIntoView();
  }

  // A section is a heading with what follows it to the next one.
  const sections = [];
  for (const article of articles) {
    let section = {id: article.id, title: article.dataset.title, of: article.dataset.title, text: ""};
    sections.push(section);
    for (const element of article.children) {
      if (/^H[1-6]$/.test(element.tagName) && element.id) {
        section = {id: element.id, title: element.textContent, of: article.dataset.title, text: ""};
        sections.push(section);
      } else {
        section.text += element.textContent + " ";
      }
    }
  }

  function found(wanted) {
    return sections
      .map((section) => {
        const title = section.title.toLowerCase();
        const text = section.text.toLowerCase();
        if (!wanted.every((word) => title.includes(word) || text.includes(word))) return null;
        const score = wanted.reduce((sum, word) => sum + (title.includes(word) ? 10 : 0) + Math.min(5, text.split(word).length - 1), 0);
        return {section, score};
      })
      .filter(Boolean)
      .sort((one, other) => other.score - one.score)
      .slice(0, 30);
  }

  function snippet(text, word) {
    const flat = text.replace(/\s+/g, " ");
    const at = Math.max(0, flat.toLowerCase().indexOf(word) - 40);
    return (at > 0 ? "..." : "") + flat.slice(at, at + 130);
  }

  function search() {
    const wanted = words.value.toLowerCase().split(/\s+/).filter(Boolean);
    hits.hidden = wanted.length === 0;
    contents.hidden = wanted.length > 0;
    hits.textContent = "";
    for (const {section} of found(wanted)) {
      const line = document.createElement("li");
      const link = document.createElement("a");
      link.href = "#" + section.id;
      link.textContent = section.title === section.of ? section.title : `${section.of}: ${section.title}`;
      const where = document.createElement("small");
      where.textContent = snippet(section.text, wanted[0]);
      line.append(link, where);
      hits.appendChild(line);
    }
    if (wanted.length > 0 && hits.children.length === 0) hits.textContent = "Nothing has all these words.";
  }

  words.addEventListener("input", search);
  window.addEventListener("hashchange", show);
  show();
})();

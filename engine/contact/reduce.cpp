#include <algorithm>

#include "engine/contact/detect.h"

namespace sherd {

void reduce_contacts(std::vector<Contact>& contacts, std::size_t limit) {
  if (contacts.size() <= limit) return;
  Box box;
  std::size_t pick = 0;
  Real shallow = contacts[0].depth;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    box.grow(contacts[i].point);
    shallow = std::min(shallow, contacts[i].depth);
    if (contacts[i].depth > contacts[pick].depth) pick = i;
  }
  const Real deepest = contacts[pick].depth, span = deepest - shallow, turn = 0.25 * norm2(box.high - box.low);
  std::vector<Real> apart(contacts.size(), std::numeric_limits<Real>::infinity());
  std::vector<char> kept(contacts.size(), 0);
  for (std::size_t n = 0; n < limit; ++n) {
    kept[pick] = 1;
    std::size_t next = contacts.size();
    Real best = 0;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      if (kept[i]) continue;
      const Real d = distance2(contacts[i].point, contacts[pick].point) +
                     turn * distance2(contacts[i].normal, contacts[pick].normal);
      apart[i] = std::min(apart[i], d);
      const Real behind = span > 0 ? (deepest - contacts[i].depth) / span : 0;
      const Real score = apart[i] * (1 - 0.95 * behind);
      if (score > best) best = score, next = i;
    }
    if (next == contacts.size()) break;  // the rest coincides with those kept
    pick = next;
  }
  std::size_t out = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i)
    if (kept[i]) contacts[out++] = contacts[i];
  contacts.resize(out);
}

}  // namespace sherd

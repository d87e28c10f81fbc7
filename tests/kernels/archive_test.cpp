// State to bytes and back: equal after a round trip, shared objects shared again, and no damage goes unseen.
#include "kernels/core/archive.h"

#include <gtest/gtest.h>

namespace sherd {
namespace {

enum class Colour : std::uint8_t { kRed, kGreen };
struct Inner {
  int a = 0;
  std::string text;
  std::vector<bool> flags;
  friend bool operator==(const Inner&, const Inner&) = default;
};
struct Outer {
  bool flag = false;
  Colour colour = Colour::kRed;
  Real number = 0;
  Inner inner;
  std::vector<Inner> list;
  std::map<std::pair<int, int>, std::string> names;
  std::optional<Real> maybe;
  std::array<std::string, 2> pair;
  Vec3Column column;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  friend bool operator==(const Outer&, const Outer&) = default;
};
struct Sharing {
  std::shared_ptr<const Outer> a, b;
  std::vector<std::shared_ptr<Inner>> others;
};

Outer sample() {
  Outer o;
  o.flag = true, o.colour = Colour::kGreen, o.number = -0.0;
  o.inner = {7, "seven", {true, false, true}};
  o.list = {{1, "", {}}, {2, std::string("nul\0in", 6), {false}}};
  o.names = {{{1, 2}, "x"}, {{0, 5}, "y"}};
  o.maybe = 1e-300;
  o.pair = {"p", "q"};
  o.column.push_back({1, 2, 3});
  o.triangles = {{0, 1, 2}, {3, 4, 5}};
  return o;
}

template <class T>
std::string bytes_of(T value) {
  Archive a;
  archive(a, value);
  return a.take();
}
template <class T>
T value_of(const std::string& bytes) {
  T value{};
  Archive a(bytes);
  archive(a, value);
  a.finish();
  return value;
}

TEST(Fields, EveryMemberOfARecordIsVisitedInOrder) {
  EXPECT_EQ(member_count<Inner>(), 3u);
  EXPECT_EQ(member_count<Outer>(), 10u);
  Inner inner{4, "four", {}};
  visit_members(inner, [](int& a, std::string& text, std::vector<bool>& flags) {
    EXPECT_EQ(a, 4);
    EXPECT_EQ(text, "four");
    EXPECT_TRUE(flags.empty());
    a = 5;
  });
  EXPECT_EQ(inner.a, 5);
}

TEST(Archive, ARoundTripGivesTheSameValueAndTheSameBytes) {
  const Outer o = sample();
  const std::string bytes = bytes_of(o);
  const Outer back = value_of<Outer>(bytes);
  EXPECT_EQ(back, o);
  EXPECT_TRUE(std::signbit(back.number));
  EXPECT_EQ(bytes_of(back), bytes);
}

TEST(Archive, ReadingReplacesWhatWasThere) {
  Outer value = sample();
  const std::string bytes = bytes_of(Outer{});
  Archive a(bytes);
  archive(a, value);
  EXPECT_EQ(value, Outer{});
}

TEST(Archive, SharedObjectsAreStoredOnceAndSharedAgain) {
  Sharing s;
  s.a = s.b = std::make_shared<Outer>(sample());
  s.others = {std::make_shared<Inner>(Inner{1, "one", {}}), nullptr};
  s.others.push_back(s.others[0]);
  const std::string bytes = bytes_of(s);
  EXPECT_LT(bytes.size(), bytes_of(sample()).size() * 3 / 2);
  const Sharing back = value_of<Sharing>(bytes);
  EXPECT_EQ(back.a, back.b);
  EXPECT_EQ(*back.a, sample());
  EXPECT_EQ(back.others[0], back.others[2]);
  EXPECT_EQ(back.others[1], nullptr);
  EXPECT_NE(back.a, s.a);
}

TEST(Archive, BytesCutShortOrTooManyAreRefused) {
  const std::string bytes = bytes_of(sample());
  for (std::size_t n = 0; n < bytes.size(); ++n) EXPECT_THROW(value_of<Outer>(bytes.substr(0, n)), ArchiveError) << n;
  EXPECT_THROW(value_of<Outer>(bytes + "x"), ArchiveError);
}

TEST(Archive, SizesAreCheckedBeforeMemoryIsTaken) {
  std::string bytes(8, '\xff');  // 2^64 - 1 elements
  EXPECT_THROW(value_of<std::vector<Real>>(bytes), ArchiveError);
  EXPECT_THROW(value_of<std::vector<Inner>>(bytes), ArchiveError);
  EXPECT_THROW(value_of<std::string>(bytes), ArchiveError);
  EXPECT_THROW((value_of<std::map<int, int>>(bytes)), ArchiveError);
  EXPECT_THROW(value_of<std::shared_ptr<Inner>>(bytes), ArchiveError);
}

TEST(Archive, AReferenceToAnObjectOfAnotherTypeIsRefused) {
  const std::string bytes = bytes_of(std::pair{std::make_shared<Inner>(), std::uint64_t{1}});
  EXPECT_THROW((value_of<std::pair<std::shared_ptr<Inner>, std::shared_ptr<Outer>>>(bytes)), ArchiveError);
}

// Multiplying by an odd number is one to one on 64 bits, so one changed byte changes all that follows.
TEST(Digest, AnySingleWrongByteChangesIt) {
  const std::string bytes = bytes_of(sample());
  const std::uint64_t sum = digest(bytes);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string wrong = bytes;
    wrong[i] = static_cast<char>(wrong[i] ^ (1 << (i % 8)));
    EXPECT_NE(digest(wrong), sum) << i;
  }
  EXPECT_EQ(digest(bytes.substr(9), digest(bytes.substr(0, 9))), sum);
  EXPECT_EQ(digest(""), 0xcbf29ce484222325u);
  EXPECT_EQ(digest("a"), 0xaf63dc4c8601ec8cu);  // published test vector of FNV-1a
}

}  // namespace
}  // namespace sherd

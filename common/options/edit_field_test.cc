#include "common/options/edit_field.h"

#include <gtest/gtest.h>

#include "common/options/nearest_name.h"

namespace isotherm {
namespace {

TEST(WithFieldSetTest, OnlyTheValueChanges) {
  EXPECT_EQ(WithFieldSet("# delay_s: 9\ndelay_s: -0.02  # measured in May\nserial: \"a\"\n",
                         "delay_s", "0.0313"),
            "# delay_s: 9\ndelay_s: 0.0313  # measured in May\nserial: \"a\"\n");
  EXPECT_EQ(WithFieldSet("a:1 delay_s:-2e-3 b:2", "delay_s", "7"), "a:1 delay_s:7 b:2");
}

TEST(WithFieldSetTest, NamesInsideOfMessagesAndStringsAreLeftAlone) {
  EXPECT_EQ(WithFieldSet("m { delay_s: 1 }\nn < delay_s: 2 >\ns: \"delay_s: 3 \\\" {\"\ndelay_s: 4",
                         "delay_s", "5"),
            "m { delay_s: 1 }\nn < delay_s: 2 >\ns: \"delay_s: 3 \\\" {\"\ndelay_s: 5");
}

TEST(WithFieldSetTest, AMissingFieldIsAdded) {
  EXPECT_EQ(WithFieldSet("a: 1", "delay_s", "5"), "a: 1\ndelay_s: 5\n");
  EXPECT_EQ(WithFieldSet("", "delay_s", "5"), "delay_s: 5\n");
}

TEST(NumberOfNameTest, NamesBecomeNumbersAndOthersAreExplained) {
  const auto number_of = NumberOfName({{"automatic", 3}, {"manual", 7}});
  std::string text = "Manual";
  EXPECT_EQ(number_of(text), "");
  EXPECT_EQ(text, "7");
  text = "manaul";
  EXPECT_EQ(number_of(text), "'manaul' is none of automatic, manual. Did you mean 'manual'?");
  EXPECT_EQ(text, "manaul");
}

}  // namespace
}  // namespace isotherm

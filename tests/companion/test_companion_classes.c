/* The sizes of classes. SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "check.h"
#include "goe_slot.h"
#include "obstacle_class.h"

#define PAGE "port/companion/README.md" /* of the folder in which tests run */
#define ROWS_MIN 10

void setUp(void) {}
void tearDown(void) {}

/* A name in a row of the page's table, from *text on; *text becomes what follows it. False: no more in its first column. */
static bool next_name(char **text, char name[OBSTACLE_CLASS_NAME_MAX]) {
    int length = 0;
    if (sscanf(*text, "%*[|, ]`%63[^`]`%n", name, &length) != 1 || length == 0) {
        return false;
    }
    *text += length;
    return true;
}

static void check_size(const char *text, float size_m, float sd_m) {
    double page_m = 0.0, page_sd_m = 0.0;
    if (strcmp(text, "unknown") != 0) {
        TEST_ASSERT_EQUAL(2, sscanf(text, "%lf +- %lf", &page_m, &page_sd_m));
    }
    CHECK_CLOSE(0.006, page_m, size_m);
    CHECK_CLOSE(0.006, page_sd_m, sd_m);
}

/* The page's row of these names. */
static void check_row(char *row) {
    static const char *const shapes[] = {"unknown", "round", "not round"};
    char name[OBSTACLE_CLASS_NAME_MAX], width[64], height[64], shape[64];
    char *rest = row;
    while (next_name(&rest, name)) {
        const char *columns = strchr(rest, '|');
        goe_kind_t kind;
        TEST_ASSERT_NOT_NULL(columns);
        TEST_ASSERT_EQUAL(3, sscanf(columns, "| %63[^|]| %63[^|]| %63[^|]|", width, height, shape));
        width[strlen(width) - 1u] = height[strlen(height) - 1u] = shape[strlen(shape) - 1u] = '\0';
        TEST_ASSERT_TRUE_MESSAGE(obstacle_class_kind(name, &kind), name);
        check_size(width, kind.width_m, kind.width_sd_m);
        check_size(height, kind.height_m, kind.height_sd_m);
        TEST_ASSERT_EQUAL_STRING(shapes[kind.shape], shape);
        TEST_ASSERT_TRUE_MESSAGE(goe_flight_slot_is_good_kind(&kind), name);
    }
}

static void the_page_has_the_table(void) {
    char line[1024];
    int rows = 0;
    bool inside = false;
    FILE *page = fopen(PAGE, "r");
    TEST_ASSERT_NOT_NULL(page);
    while (fgets(line, sizeof line, page) != NULL) {
        inside = (inside && line[0] == '|') || strncmp(line, "| class | width", 15) == 0;
        if (inside && strncmp(line, "| `", 3) == 0) {
            check_row(line);
            rows++;
        }
    }
    (void)fclose(page);
    TEST_ASSERT_TRUE(rows >= ROWS_MIN);
}

/* For any case of the letters; another name has no size. */
static void a_name_is_a_whole_word(void) {
    static const char *const others[] = {"", "ca", "cars", "cow", " car", "car "};
    goe_kind_t kind;
    TEST_ASSERT_TRUE(obstacle_class_kind("cAR", &kind));
    CHECK_CLOSE(1e-6, 3.3, kind.width_m); /* the middle of 1.8 and 4.8 */
    CHECK_CLOSE(1e-5, 3.0 / sqrt(12.0), kind.width_sd_m);
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        (void)memset(&kind, 0xA5, sizeof kind);
        TEST_ASSERT_FALSE(obstacle_class_kind(others[i], &kind));
        CHECK_SAME(0.0f, kind.width_m);
        CHECK_SAME(0.0f, kind.width_sd_m);
        CHECK_SAME(0.0f, kind.height_m);
        CHECK_SAME(0.0f, kind.height_sd_m);
        TEST_ASSERT_EQUAL_UINT8(GOE_KIND_UNKNOWN, kind.shape);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(the_page_has_the_table);
    RUN_TEST(a_name_is_a_whole_word);
    return UNITY_END();
}

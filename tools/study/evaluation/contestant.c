#include "study/evaluation/contestant.h"

#include <stdio.h>
#include <string.h>

#include "reconstruction/options/chosen_head.h"
#include "cli/cli.h"

static int add_head(evaluation_contestants *chosen, const char *text, bool named)
{
    chosen_head head;
    int code = chosen_head_open(&head, text);
    if (code != CLI_OK) {
        return code;
    }
    evaluation_contestant *it = &chosen->list[chosen->count++];
    *it = (evaluation_contestant){.method = METHOD_TRIM3R, .head = text};
    if (!named) {
        snprintf(it->label, sizeof it->label, "%s", method_name(METHOD_TRIM3R));
    } else if (head.weights == NULL || strcmp(head.bits, "8") == 0) {
        snprintf(it->label, sizeof it->label, "%s", head.name);
    } else {
        snprintf(it->label, sizeof it->label, "%s_w%ua%u", head.name, head.weight_bits, head.activation_bits);
    }
    chosen_head_close(&head);
    for (const evaluation_contestant *earlier = chosen->list; earlier < it; earlier++) {
        if (earlier->method == METHOD_TRIM3R && strcmp(earlier->label, it->label) == 0) {
            return cli_error(CLI_BAD_USAGE, "--heads: %s and %s have the same name and bits (quantize --name)",
                             earlier->head, text);
        }
    }
    return CLI_OK;
}

int evaluation_contestants_methods(evaluation_contestants *chosen, const method_id *methods, uint32_t method_count,
                                   char *const *heads, uint32_t head_count, const reconstruction_options *settings)
{
    int code = CLI_OK;
    chosen->count = 0;
    for (uint32_t m = 0; m < method_count && code == CLI_OK; m++) {
        if (methods[m] == METHOD_TRIM3R && head_count > 0) {
            for (uint32_t h = 0; h < head_count && code == CLI_OK; h++) {
                code = add_head(chosen, heads[h], true);
            }
        } else if (methods[m] == METHOD_TRIM3R) {
            code = add_head(chosen, settings->head, false);
        } else {
            evaluation_contestant *it = &chosen->list[chosen->count++];
            *it = (evaluation_contestant){.method = methods[m]};
            snprintf(it->label, sizeof it->label, "%s", method_name(it->method));
        }
    }
    return code;
}

void evaluation_contestants_scene(evaluation_contestants *chosen)
{
    *chosen = (evaluation_contestants){.count = 1, .list = {{.method = METHOD_TRIM3R, .label = EVALUATION_SCENE}}};
}

static void add_ablation(evaluation_contestants *chosen, uint32_t ablation)
{
    evaluation_contestant *it = &chosen->list[chosen->count++];
    *it = (evaluation_contestant){.method = METHOD_TRIM3R, .ablated = true, .ablation = ablation};
    snprintf(it->label, sizeof it->label, "%s", ablation_name(ablation));
}

int evaluation_contestants_ablations(evaluation_contestants *chosen, const uint32_t *ablations, uint32_t count,
                                     bool planar, const reconstruction_options *settings)
{
    chosen_head head;
    int code = chosen_head_open(&head, settings->head);
    if (code != CLI_OK) {
        return code;
    }
    chosen->count = 0;
    for (uint32_t a = 0; count == 0 && ablation_name(a) != NULL; a++) {
        if (ablation_applies(a, &head, planar)) {
            add_ablation(chosen, a);
        }
    }
    for (uint32_t i = 0; i < count && code == CLI_OK; i++) {
        if (!ablation_applies(ablations[i], &head, planar)) {
            code = cli_error(CLI_BAD_USAGE, "--ablate: %s does not apply to %s", ablation_name(ablations[i]),
                             planar ? "a single image with this head" : "this head");
        }
        add_ablation(chosen, ablations[i]);
    }
    chosen_head_close(&head);
    return code;
}

reconstruction_options evaluation_contestant_settings(const evaluation_contestant *it,
                                                      const reconstruction_options *settings)
{
    reconstruction_options own = *settings;
    own.head = it->head != NULL ? it->head : settings->head;
    if (it->ablated) {
        ablation_apply(it->ablation, &own);
    }
    return own;
}

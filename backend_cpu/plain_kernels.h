/* Included first by the translation units that compile kernels a second time, for scenes that have only FEATURES_PLAIN.
 * The code of the other features, though it never runs there, would make them some percent slower: by its tests, and
 * because the compiler keeps less in registers around it. */
#ifndef TWINLIGHT_PLAIN_KERNELS_H
#define TWINLIGHT_PLAIN_KERNELS_H

#define FEATURES_KNOWN FEATURES_PLAIN
#ifndef KERNEL_LOOP_NAME
#define KERNEL_LOOP_NAME(name) kernel_plain_##name
#endif

#endif

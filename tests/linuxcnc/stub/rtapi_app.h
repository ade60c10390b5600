/* SPDX-License-Identifier: GPL-3.0-or-later */
#define EXPORT_SYMBOL(name) extern int chaintrue_stub_of_##name
#define MODULE_LICENSE(text) extern const char *chaintrue_stub_licence

/* Included by what stands above: no offence. */

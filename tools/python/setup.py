# SPDX-License-Identifier: Apache-2.0
"""For pip: what it makes of the package holds a shared library, so it is for this kind of machine alone."""
from setuptools import Distribution, setup


class WithLibrary(Distribution):
    def has_ext_modules(self):
        return True


setup(distclass=WithLibrary)

"""What is to be known of all skins together: where they are, and whether all is well."""

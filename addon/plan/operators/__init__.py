"""What a plan is made and edited by."""
